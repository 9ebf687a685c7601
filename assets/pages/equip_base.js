/* SPDX-License-Identifier: Apache-2.0 */
/* What all steps of `parhelion equip`'s page share: its state, names that mean one thing, and
   small controls. equip.js sets changed and rebuild. */
var equipBase=(function(){
var view=equipView,data=view.data;
/* kept: materials as a file that was opened has them, with figures of its own. */
var state={displays:[],eyes:[],as:{},kept:{},mode:'display',chosen:null,lit:null,
  forwardIsChosen:false};
var base={state:state,pictures:{},changed:null,rebuild:null};
function $(id){return document.getElementById(id);}
/* A name as it may be shown (print/printable.h); what is typed and saved stays as it is. */
function shown(text){
  return String(text).replace(
    /[\u0000-\u001f\u007f-\u009f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]/g,function(c){
      return '\\u'+c.charCodeAt(0).toString(16).toUpperCase().padStart(4,'0');});
}
function make(tag,attributes,text){
  var e=document.createElement(tag);
  for(var key in attributes||{})
    if(key in e&&typeof attributes[key]!=='string')e[key]=attributes[key];
    else e.setAttribute(key,key==='value'?attributes[key]:shown(attributes[key]));
  if(text!==undefined)e.textContent=shown(text);
  return e;
}
function say(text,isBad){
  $('hint').textContent=shown(text);
  $('hint').classList.toggle('bad',!!isBad);
}
function round(v){return Math.round(v*1e6)/1e6+0;}
function list(v){return v.isVector3?[round(v.x),round(v.y),round(v.z)]:v.map(round);}
function vector(p){return new THREE.Vector3(p[0],p[1],p[2]);}
/* The page is in the scene's coordinates, its file in the world's. Of one or several places. */
function inWorld(p){return list(p).map(function(x,i){return round(x+data.origin[i%3]);});}
function fromWorld(p){return p.map(function(x,i){return x-data.origin[i%3];});}

/* ---- names: each means one thing ---- */
function isTaken(name,but){
  return state.displays.concat(state.eyes).some(function(x){return x!==but&&x.name===name;})||
    data.parts.some(function(p){return p.name===name;})||
    data.materials.some(function(m){return m.name===name;})||
    data.cameras.some(function(c){return c.name===name;});
}
function freeName(wish){
  var name=wish;
  for(var i=2;isTaken(name);i++)name=wish+' '+i;
  return name;
}
function nameField(item,after){
  var field=make('input',{type:'text','aria-label':'Name',value:item.name});
  field.addEventListener('input',function(){
    var name=field.value.trim(),bad=!name?'a name is required':isTaken(name,item)?
      'the model has that name already':'';
    field.setCustomValidity(bad);
    item.bad=bad&&'"'+name+'": '+bad;
    item.name=name;
    after();
  });
  return field;
}

/* ---- small controls ---- */
function numberField(label,get,set,step){
  var box=make('label',{},label+' '),field=make('input',{type:'number',step:'any'});
  field.value=get();
  field.dataset.step=step;
  field.addEventListener('input',function(){
    if(!isFinite(field.valueAsNumber))return;
    set(field.valueAsNumber);
    base.changed();
  });
  field.addEventListener('keydown',function(e){
    if(e.key!=='ArrowUp'&&e.key!=='ArrowDown')return;
    e.preventDefault();
    field.value=+((field.valueAsNumber||0)+(e.key==='ArrowUp'?step:-step)).toFixed(6);
    field.dispatchEvent(new Event('input'));
  });
  box.append(field);
  return box;
}
function choice(label,words,value,set){
  var box=make('label',{},label+' '),select=make('select');
  words.forEach(function(w){select.append(make('option',{value:w[0]},w[1]));});
  select.value=value;
  select.addEventListener('change',function(){set(select.value);base.changed();});
  box.append(select);
  return box;
}
/* One of those that ship, or a path beside the model. */
function fileChoice(label,names,none,item,key){
  var words=names.map(function(n){return [n,n];}).concat(none?[['',none]]:[],
    [['*','a file of your own ...']]);
  var isOwn=item[key]&&!names.includes(item[key]);
  var box=choice(label,words,isOwn?'*':item[key],function(v){
    own.hidden=v!=='*';
    item[key]=v==='*'?own.value:v;
  });
  var own=make('input',{type:'text',placeholder:'path, as seen from the model',
    'aria-label':label+': path',hidden:!isOwn,value:isOwn?item[key]:''});
  own.addEventListener('input',function(){item[key]=own.value.trim();base.changed();});
  box.append(own);
  return box;
}
function card(item,title,from){
  var box=make('div',{'class':'card'}),top=make('div',{'class':'top'});
  var away=make('button',{type:'button','class':'plain','aria-label':'Remove '+title},'Remove');
  box.classList.toggle('chosen',state.chosen===item);
  top.append(nameField(item,function(){base.changed();}),away);
  away.addEventListener('click',function(){
    state.displays=state.displays.filter(function(x){return x!==item;});
    state.eyes=state.eyes.filter(function(x){return x!==item;});
    state.eyes.forEach(function(e){if(e.looks===item)e.looks=state.displays[0]||null;});
    base.rebuild();
  });
  box.append(top,make('p',{'class':'from'},from));
  return box;
}
return Object.assign(base,{$:$,shown:shown,make:make,say:say,round:round,list:list,vector:vector,
  inWorld:inWorld,fromWorld:fromWorld,  isTaken:isTaken,freeName:freeName,numberField:numberField,choice:choice,
  fileChoice:fileChoice,card:card});
})();
